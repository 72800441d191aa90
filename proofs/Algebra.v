(** * Algebra of kicks and drifts

    - [det_propagator]      every schedule has determinant 1;
    - [propagator_rev]      the reversed schedule has the mirrored propagator;
    - [palindrome]          Q = mirror H ** H for a palindrome, Tr Q - 2 = 4BC, Tr Q + 2 = 4AD;
    - [palindrome_schedule] kicks that are symmetric in time make the schedule a palindrome;
    - [staggered_conjugate], [staggered_trace]
                            the event loop's product is conjugate to the symmetric one: same trace;
    - [scaling]             (h, L) |-> (c h, L / c^2) conjugates the propagator by diag(1, c).   *)

From Kickdrift Require Import Vocabulary.
From Coq Require Import Reals List Arith Lia Lra.
Import ListNotations.
Open Scope R_scope.

(** ** Matrices are equal when their entries are *)

Lemma mat_ext M N : mA M = mA N -> mB M = mB N -> mC M = mC N -> mD M = mD N -> M = N.
Proof. destruct M, N; simpl; congruence. Qed.

Ltac matrix_ring := intros; apply mat_ext; simpl; ring.

Lemma mul_assoc L M N : L ** (M ** N) = L ** M ** N.        Proof. matrix_ring. Qed.
Lemma mul_one_l M : one ** M = M.                            Proof. matrix_ring. Qed.
Lemma mul_one_r M : M ** one = M.                            Proof. matrix_ring. Qed.
Lemma opp_mul M N : opp M ** opp N = M ** N.                 Proof. matrix_ring. Qed.
Lemma mirror_mul M N : mirror (M ** N) = mirror N ** mirror M. Proof. matrix_ring. Qed.
Lemma mirror_mirror M : mirror (mirror M) = M.               Proof. matrix_ring. Qed.
Lemma kick_add k l : kick k ** kick l = kick (k + l).        Proof. matrix_ring. Qed.
Lemma drift_add s t : drift s ** drift t = drift (s + t).    Proof. matrix_ring. Qed.
Lemma kick_zero : kick 0 = one.                              Proof. matrix_ring. Qed.
Lemma drift_zero : drift 0 = one.                            Proof. matrix_ring. Qed.
Lemma act_mul M N u : (M ** N) @ u = M @ N @ u.
Proof. unfold act, mul; destruct u; simpl; f_equal; ring. Qed.

Lemma det_mul M N : det (M ** N) = det M * det N.
Proof. unfold det; simpl; ring. Qed.
Lemma tr_mul_comm M N : tr (M ** N) = tr (N ** M).
Proof. unfold tr; simpl; ring. Qed.

Lemma power_add M m n : power M (m + n) = power M m ** power M n.
Proof.
  induction m as [|m IH]; simpl; [now rewrite mul_one_l|].
  now rewrite IH, mul_assoc.
Qed.

Lemma power_succ_r M n : power M (S n) = power M n ** M.
Proof. rewrite <- (Nat.add_1_r n), power_add; simpl; now rewrite mul_one_r. Qed.

(** ** Products over schedules *)

Lemma matrix_of_det e : det (matrix_of e) = 1.
Proof. destruct e; unfold det; simpl; ring. Qed.

Theorem det_propagator l : det (propagator l) = 1.
Proof.
  induction l as [|e l IH]; simpl; [unfold det; simpl; ring|].
  rewrite det_mul, IH, matrix_of_det; ring.
Qed.

Lemma propagator_app l m : propagator (l ++ m) = propagator m ** propagator l.
Proof.
  induction l as [|e l IH]; simpl; [now rewrite mul_one_r|].
  now rewrite IH, mul_assoc.
Qed.

Theorem propagator_rev l : propagator (rev l) = mirror (propagator l).
Proof.
  induction l as [|e l IH]; simpl; [matrix_ring|].
  rewrite propagator_app, IH, mirror_mul; simpl; rewrite mul_one_l.
  f_equal; destruct e; matrix_ring.
Qed.

Theorem palindrome h :
  let H := propagator h in
  let Q := propagator (h ++ rev h) in
  Q = mirror H ** H /\
  tr Q = 2 * (mA H * mD H + mB H * mC H) /\
  tr Q - 2 = 4 * (mB H * mC H) /\
  tr Q + 2 = 4 * (mA H * mD H).
Proof.
  intros H Q.
  assert (EQ : Q = mirror H ** H) by (unfold Q, H; now rewrite propagator_app, propagator_rev).
  assert (D : mA H * mD H - mB H * mC H = 1) by apply (det_propagator h).
  rewrite EQ; unfold tr; simpl; repeat split; lra.
Qed.

(** ** Ticks *)

Lemma schedule_succ f d n : schedule f d (S n) = schedule f d n ++ leg f d n.
Proof. unfold schedule; now rewrite seq_S, flat_map_app. Qed.

Lemma propagator_schedule_succ f d n :
  propagator (schedule f d (S n)) =
  kick (f (S n) / 2) ** drift d ** kick (f n / 2) ** propagator (schedule f d n).
Proof.
  rewrite schedule_succ, propagator_app; simpl; now rewrite mul_one_l.
Qed.

(** Shifting the ticks: the second part of a schedule is a schedule of the later kicks. *)
Lemma schedule_add f d m n :
  schedule f d (m + n) = schedule f d m ++ schedule (fun j => f (m + j)%nat) d n.
Proof.
  induction n as [|n IH]; [rewrite Nat.add_0_r; unfold schedule at 3; simpl; now rewrite app_nil_r|].
  rewrite Nat.add_succ_r, !schedule_succ, IH, app_assoc_reverse.
  unfold leg; now rewrite Nat.add_succ_r.
Qed.

Lemma schedule_ext f g d n : (forall j, (j <= n)%nat -> f j = g j) -> schedule f d n = schedule g d n.
Proof.
  intros E; induction n as [|n IH]; [reflexivity|].
  rewrite !schedule_succ, IH by (intros; apply E; lia).
  unfold leg; now rewrite !E by lia.
Qed.

Lemma schedule_rev f d n : rev (schedule f d n) = schedule (fun j => f (n - j)%nat) d n.
Proof.
  induction n as [|n IH]; [reflexivity|].
  rewrite schedule_succ, rev_app_distr, IH.
  change (S n) with (1 + n)%nat at 2; rewrite (schedule_add _ _ 1 n).
  unfold schedule at 2, leg; simpl; now rewrite Nat.sub_0_r.
Qed.

Theorem palindrome_schedule f d n :
  (forall j, (j <= 2 * n)%nat -> f (2 * n - j)%nat = f j) ->
  schedule f d (2 * n) = schedule f d n ++ rev (schedule f d n).
Proof.
  intros sym; rewrite schedule_rev.
  replace (2 * n)%nat with (n + n)%nat by lia; rewrite schedule_add; f_equal.
  apply schedule_ext; intros j J.
  rewrite <- (sym (n - j)%nat) by lia; f_equal; lia.
Qed.

(** ** The event loop *)

Lemma staggered_conjugate f d n :
  kick (f n / 2) ** propagator (staggered f d n) = propagator (schedule f d n) ** kick (f O / 2).
Proof.
  induction n as [|n IH]; [simpl; matrix_ring|].
  unfold staggered; rewrite seq_S, flat_map_app; simpl flat_map; fold (staggered f d n).
  rewrite propagator_app, propagator_schedule_succ.
  replace (kick (f (S n) / 2) ** drift d ** kick (f n / 2) ** propagator (schedule f d n) ** kick (f O / 2))
    with (kick (f (S n) / 2) ** drift d ** kick (f n / 2) ** (propagator (schedule f d n) ** kick (f O / 2)))
    by matrix_ring.
  rewrite <- IH; generalize (propagator (staggered f d n)); intros P.
  apply mat_ext; simpl; field.
Qed.

Theorem staggered_trace f d n :
  f n = f O -> tr (propagator (staggered f d n)) = tr (propagator (schedule f d n)).
Proof.
  intros E; pose proof (staggered_conjugate f d n) as C; rewrite E in C.
  set (h := f O / 2) in *.
  assert (S : propagator (staggered f d n) = kick (- h) ** (propagator (schedule f d n) ** kick h)).
  { rewrite <- C, mul_assoc, kick_add, Rplus_opp_l, kick_zero; now rewrite mul_one_l. }
  rewrite S, tr_mul_comm, <- mul_assoc, kick_add, Rplus_opp_r, kick_zero; now rewrite mul_one_r.
Qed.

(** ** Units of time *)

Definition rescale (c : R) (M : mat) := Mat (mA M) (mB M * c) (mC M / c) (mD M).

Lemma rescale_mul c M N : c <> 0 -> rescale c (M ** N) = rescale c M ** rescale c N.
Proof. intros; apply mat_ext; simpl; now field. Qed.

Theorem scaling f d n c :
  c <> 0 ->
  propagator (schedule (fun j => f j / c) (d * c) n) = rescale c (propagator (schedule f d n)).
Proof.
  intros C; induction n as [|n IH]; [apply mat_ext; simpl; now field|].
  rewrite !propagator_schedule_succ, IH, !rescale_mul by assumption.
  f_equal; apply mat_ext; simpl; now field.
Qed.
