(** * The label of an unstable period

    A period of kicks and drifts of strength >= 0 turns every direction clockwise. Where it keeps a line it turns that line
    by a whole number of half turns: its label.

    strength e, is_kick e == the strength of a kick or drift; which of the two it is
    forward l        == no strength of the list l is negative
    angles l         == the map of angles of the list l, first step first
    label l N        == some direction is turned clockwise by exactly N half turns
    at_step h w      == the list w with all strengths multiplied by h
    touching w       == a kick and a drift of positive strength stand next to each other in w
    period p q L1 L2 h == the steps of two clocks with h1 = h, h2 = (p/q) h over the synchronization period

    - [label_exists]   there is a label iff |Tr| >= 2;
    - [label_unique]   and only one;
    - [label_side]     it is not negative; Tr >= 2 where it is even, Tr <= -2 where it is odd;
    - [label_grows]    it does not fall as the step grows;
    - [label_between]  where it is the same at two steps, it is the same at every step in between, which is hyperbolic;
    - [two_clocks_between]  so for two clocks whose steps have a fixed ratio.                                      *)

From Kickdrift Require Import Vocabulary Algebra Stability Plane Cone Between.
From Coq Require Import Reals ZArith List Lra Lia Psatz.
Import ListNotations.
Open Scope R_scope.

(** ** Lists of kicks and drifts *)

Definition strength (e : step) := match e with Kick k => k | Drift t => t end.
Definition is_kick (e : step) := match e with Kick _ => true | Drift _ => false end.
Definition forward (l : list step) := Forall (fun e => 0 <= strength e) l.

Fixpoint angles (l : list step) (x : R) : R :=
  match l with [] => x | e :: rest => angles rest (turned (matrix_of e) x) end.

Definition label (l : list step) (N : Z) := exists x, angles l x = x - IZR N * PI.

Lemma matrix_shear e : matrix_of e = shear (is_kick e) (strength e).
Proof. now destruct e. Qed.

Lemma step_lift e : 0 <= strength e ->
  sends (matrix_of e) (turned (matrix_of e)) /\ lift (turned (matrix_of e)) /\ forall x, turned (matrix_of e) x <= x.
Proof.
  intros S; rewrite matrix_shear; destruct (clockwise_shear (is_kick e) _ S) as [D C].
  destruct (turned_lift _ D C) as (T & L & B); split; [exact T|]; split; [exact L | intros; apply B].
Qed.

Lemma angles_lift l : forward l ->
  sends (propagator l) (angles l) /\ lift (angles l) /\ forall x, angles l x <= x.
Proof.
  induction 1 as [|e l S F (T & L & B)]; simpl.
  - split; [|split; [split; auto | intros; lra]].
    intros x; exists 1; split; [lra | apply vec_ext; simpl; ring].
  - destruct (step_lift e S) as (T' & L' & B'); split; [|split].
    + intros x; destruct (T' x) as (c & C & E), (T (turned (matrix_of e) x)) as (d & D & G).
      exists (c * d); split; [now apply Rmult_lt_0_compat|]; rewrite act_mul, E.
      transitivity (smul c (propagator l @ direction (turned (matrix_of e) x))); [apply vec_ext; simpl; ring|].
      rewrite G; apply vec_ext; simpl; ring.
    + split; intros; [apply L, L'; assumption | now rewrite (proj2 L'), (proj2 L)].
    + intros x; specialize (B (turned (matrix_of e) x)); specialize (B' x); lra.
Qed.

(** ** A label where a line is kept *)

Lemma polar v : v <> zero -> exists r x, 0 < r /\ v = smul r (direction x).
Proof.
  intros Z; pose proof (len_pos v Z) as P; pose proof (len_sqr v) as E.
  destruct v as [p q]; set (r := len (Vec p q)) in *; unfold dot in E; simpl in E.
  set (c := p / r); assert (Ep : p = r * c) by (unfold c; field; lra).
  assert (B : -1 <= c <= 1).
  { assert (0 <= 1 - c * c); [|split; nra].
    apply Rmult_le_reg_l with (r * r); [nra|]; rewrite Rmult_0_r.
    replace (r * r * (1 - c * c)) with (q * q) by (rewrite Ep in E; lra); apply Rle_0_sqr. }
  pose proof (cos_acos c B) as Co; pose proof (acos_bound c) as A.
  assert (S : 0 <= sin (acos c)) by (apply sin_ge_0; lra).
  pose proof (sin2_cos2 (acos c)) as U; unfold Rsqr in U; rewrite Co in U.
  assert (Q : q * q = r * sin (acos c) * (r * sin (acos c))).
  { transitivity (r * r * (sin (acos c) * sin (acos c))); [|ring].
    replace (sin (acos c) * sin (acos c)) with (1 - c * c) by lra; rewrite Ep in E; lra. }
  assert (RS : 0 <= r * sin (acos c)) by (apply Rmult_le_pos; lra).
  exists r; destruct (Rle_dec 0 q) as [Pos|Neg]; [exists (acos c) | exists (- acos c)];
    (split; [exact P|]); apply vec_ext; simpl; rewrite ?cos_neg, ?sin_neg, ?Co; try exact Ep.
  - apply Rsqr_inj; [exact Pos | exact RS | exact Q].
  - assert (- q = r * sin (acos c)); [|lra].
    apply Rsqr_inj; [lra | exact RS |]; unfold Rsqr; lra.
Qed.

(** A real eigenvalue has an eigenvector. *)
Lemma eigenvector Q : det Q = 1 -> 2 <= Rabs (tr Q) -> exists s v, v <> zero /\ Q @ v = smul s v.
Proof.
  intros D T; destruct Q as [a b c d]; unfold det, tr in *; simpl in *.
  assert (P : 0 <= (a + d) * (a + d) - 4) by (unfold Rabs in T; destruct Rcase_abs in T; nra).
  set (w := sqrt ((a + d) * (a + d) - 4)); pose proof (sqrt_sqrt _ P) as W; fold w in W.
  set (s := (a + d + w) / 2); assert (Es : s * s - (a + d) * s + 1 = 0) by (unfold s; nra).
  assert (NZ : forall p q, (p <> 0 \/ q <> 0) -> Vec p q <> zero).
  { intros p q O E; unfold zero in E; injection E; intros; destruct O; contradiction. }
  exists s; destruct (Req_dec b 0) as [B|B].
  - destruct (Req_dec c 0) as [C|C].
    + assert (R : (s - a) * (s - d) = 0) by (rewrite B, C in D; nra).
      destruct (Rmult_integral _ _ R); [exists (Vec 1 0) | exists (Vec 0 1)];
        (split; [apply NZ; lra | apply vec_ext; simpl; rewrite ?B, ?C; lra]).
    + exists (Vec (s - d) c); split; [now apply NZ; right | apply vec_ext; simpl; nra].
  - exists (Vec b (s - a)); split; [now apply NZ; left | apply vec_ext; simpl; nra].
Qed.

Lemma eigenvalue Q s u : det Q = 1 -> dot u u = 1 -> Q @ u = smul s u -> s * s - tr Q * s + 1 = 0.
Proof.
  destruct Q as [a b c d], u as [p q]; unfold det, dot, tr; simpl; intros D U E; injection E as E1 E2.
  rewrite <- D; set (t := s * s - (a + d) * s + (a * d - b * c)).
  assert (P : t * p = 0).
  { transitivity ((a * p + b * q - s * p) * (d - s) - b * (c * p + d * q - s * q)); [unfold t; ring | rewrite E1, E2; ring]. }
  assert (Q : t * q = 0).
  { transitivity ((c * p + d * q - s * q) * (a - s) - c * (a * p + b * q - s * p)); [unfold t; ring | rewrite E1, E2; ring]. }
  transitivity (t * p * p + t * q * q); [|rewrite P, Q; ring].
  rewrite <- (Rmult_1_r t) at 1; rewrite <- U; ring.
Qed.

Lemma parity_sqr N : parity N * parity N = 1.
Proof. unfold parity; destruct Z.even; ring. Qed.

Theorem label_side l N : forward l -> label l N -> (0 <= N)%Z /\ 2 <= parity N * tr (propagator l).
Proof.
  intros F (x & X); destruct (angles_lift l F) as (T & _ & B); split.
  - specialize (B x); rewrite X in B; pose proof PI_RGT_0; apply le_IZR; nra.
  - destruct (T x) as (c & C & E); pose proof (det_propagator l) as D; set (Q := propagator l) in *.
    assert (E' : Q @ direction x = smul (parity N * c) (direction x)).
    { rewrite E, X; pose proof (direction_half_turns N (x - IZR N * PI)) as H.
      replace (x - IZR N * PI + IZR N * PI) with x in H by ring; rewrite H.
      transitivity (smul (parity N * parity N * c) (direction (x - IZR N * PI)));
        [rewrite parity_sqr|]; apply vec_ext; simpl; ring. }
    set (s := parity N * c) in *; pose proof (dot_direction x) as U.
    assert (Es : s * s - tr Q * s + 1 = 0) by (apply (eigenvalue Q s (direction x)); assumption).
    assert (Ec : c * c - parity N * tr Q * c + 1 = 0).
    { transitivity (s * s - tr Q * s + 1); [|exact Es]; unfold s.
      transitivity (parity N * parity N * (c * c) - parity N * tr Q * c + 1); [rewrite parity_sqr|]; ring. }
    pose proof (Rle_0_sqr (c - 1)) as Sq; unfold Rsqr in Sq; nra.
Qed.

Theorem label_exists l : forward l -> (exists N, label l N) <-> 2 <= Rabs (tr (propagator l)).
Proof.
  intros F; split.
  - intros (N & L); destruct (label_side l N F L) as [_ S].
    unfold parity in S; unfold Rabs; destruct Z.even, Rcase_abs; lra.
  - intros H; destruct (eigenvector _ (det_propagator l) H) as (s & v & Z & E).
    destruct (polar v Z) as (r & x & P & ->), (angles_lift l F) as (T & _ & _), (T x) as (c & C & G).
    assert (E' : propagator l @ direction x = smul s (direction x)).
    { pose proof (f_equal position E) as E1; pose proof (f_equal velocity E) as E2; simpl in *.
      apply vec_ext; simpl; apply Rmult_eq_reg_l with r; lra. }
    assert (S : sin (angles l x - x) = 0).
    { apply Rmult_eq_reg_l with c; [|lra]; rewrite Rmult_0_r, <- cross_direction.
      transitivity (cross (direction x) (smul c (direction (angles l x)))); [coordinates; ring|].
      rewrite <- G, E'; coordinates; ring. }
    destruct (sin_eq_0_0 _ S) as (k & K); exists (- k)%Z, x; rewrite opp_IZR; lra.
Qed.

(** Of two maps of angles, the one that turns further has the larger label. *)
Lemma label_order F G x y M N : lift F -> (forall z, G z <= F z) ->
  F x = x - IZR M * PI -> G y = y - IZR N * PI -> (M <= N)%Z.
Proof.
  intros L O X Y; pose proof PI_RGT_0 as P; destruct (half_turn_below x y) as (j & J1 & J2).
  specialize (O y); pose proof (lift_le F _ _ L J2) as U; rewrite (proj2 L), lift_half_turns, X in U by exact L.
  apply Z.lt_succ_r, lt_IZR; rewrite succ_IZR; nra.
Qed.

Theorem label_unique l M N : forward l -> label l M -> label l N -> M = N.
Proof.
  intros F (x & X) (y & Y); destruct (angles_lift l F) as (_ & L & _).
  apply Z.le_antisymm; eapply label_order; try eassumption; intros; apply Rle_refl.
Qed.

(** ** One list at several steps *)

Definition times (h : R) (e : step) := match e with Kick k => Kick (h * k) | Drift t => Drift (h * t) end.
Definition at_step (h : R) (w : list step) := map (times h) w.

Definition touching (w : list step) := exists u e e' v,
  w = u ++ e :: e' :: v /\ is_kick e' = negb (is_kick e) /\ 0 < strength e /\ 0 < strength e'.

Lemma forward_at_step h w : 0 <= h -> forward w -> forward (at_step h w).
Proof. intros H; induction 1 as [|[k|t] w S F IH]; constructor; simpl in *; try assumption; now apply Rmult_le_pos. Qed.

Theorem label_grows w low high M N : forward w -> 0 <= low <= high ->
  label (at_step low w) M -> label (at_step high w) N -> (M <= N)%Z.
Proof.
  intros F O (x & X) (y & Y).
  destruct (angles_lift (at_step low w)) as (_ & L & _); [now apply forward_at_step|].
  apply (label_order (angles (at_step low w)) (angles (at_step high w)) x y); try assumption.
  clear x y X Y L; induction F as [|e w S F IH]; intros z; simpl; [lra|].
  destruct (angles_lift (at_step high w)) as (_ & L & _); [apply forward_at_step; [lra | exact F]|].
  apply Rle_trans with (angles (at_step high w) (turned (matrix_of (times low e)) z)); [|apply IH].
  apply lift_le; [exact L|].
  destruct e as [k|t]; simpl in *; [apply (further_shear true) | apply (further_shear false)]; split; nra.
Qed.

(** The same as products over the numbered steps. *)
Definition kind_of (w : list step) k := is_kick (nth k w (Drift 0)).
Definition weight (w : list step) k := strength (nth k w (Drift 0)).

Lemma nth_at_step h w k : matrix_of (nth k (at_step h w) (Drift (h * 0))) = shear (kind_of w k) (h * weight w k).
Proof.
  unfold at_step, kind_of, weight; change (Drift (h * 0)) with (times h (Drift 0)); rewrite map_nth.
  now destruct nth.
Qed.

Lemma product_ext M M' n : (forall k, (k < n)%nat -> M k = M' k) -> product M n = product M' n.
Proof. induction n as [|n IH]; intros H; simpl; [reflexivity|]; rewrite H, IH; auto. Qed.

Lemma compose_ext f f' n x : (forall k, (k < n)%nat -> f k = f' k) -> compose f n x = compose f' n x.
Proof. induction n as [|n IH]; intros H; simpl; [reflexivity|]; rewrite H, IH; auto. Qed.

Lemma propagator_product l d : propagator l = product (fun k => matrix_of (nth k l d)) (length l).
Proof.
  induction l as [|e l IH] using rev_ind; [reflexivity|].
  rewrite propagator_app, app_length, Nat.add_1_r; simpl; rewrite mul_one_l, nth_middle, IH; f_equal.
  apply product_ext; intros k K; now rewrite app_nth1.
Qed.

Lemma angles_app l m x : angles (l ++ m) x = angles m (angles l x).
Proof. revert x; induction l; simpl; auto. Qed.

Lemma angles_compose l d x : angles l x = compose (fun k => turned (matrix_of (nth k l d))) (length l) x.
Proof.
  induction l as [|e l IH] using rev_ind; [reflexivity|].
  rewrite angles_app, app_length, Nat.add_1_r; simpl; rewrite nth_middle, IH; f_equal.
  apply compose_ext; intros k K; now rewrite app_nth1.
Qed.

Lemma propagator_at_step h w :
  propagator (at_step h w) = product (fun k => shear (kind_of w k) (h * weight w k)) (length w).
Proof.
  rewrite (propagator_product _ (Drift (h * 0))); unfold at_step at 2; rewrite map_length.
  apply product_ext; intros; apply nth_at_step.
Qed.

Lemma angles_at_step h w x :
  angles (at_step h w) x = compose (at_strength (kind_of w) (fun k => h * weight w k)) (length w) x.
Proof.
  rewrite (angles_compose _ (Drift (h * 0))); unfold at_step at 2; rewrite map_length.
  apply compose_ext; intros; unfold at_strength; now rewrite nth_at_step.
Qed.

Theorem label_between w low h high N :
  forward w -> touching w -> 0 <= low < h -> h < high ->
  label (at_step low w) N -> label (at_step high w) N ->
  let Q := propagator (at_step h w) in
  label (at_step h w) N /\ 2 < Rabs (tr Q) /\ exponential_growth Q /\
  (Z.Even N -> 2 < tr Q) /\ (Z.Odd N -> tr Q < -2).
Proof.
  intros F (u & e & e' & v & W & Alt & P & P') L H A B Q.
  assert (C : 2 < Rabs (tr Q) /\ exponential_growth Q /\ (Z.Even N -> 2 < tr Q) /\ (Z.Odd N -> tr Q < -2)).
  { destruct A as (x & X), B as (y & Y); rewrite angles_at_step in X, Y.
    assert (Wt : forall k, (k < length w)%nat -> 0 <= weight w k).
    { intros k K; unfold weight; apply (proj1 (Forall_forall _ w) F), nth_In, K. }
    assert (J : nth (length u) w (Drift 0) = e) by (rewrite W; apply nth_middle).
    assert (J' : nth (S (length u)) w (Drift 0) = e').
    { rewrite W; replace (u ++ e :: e' :: v) with ((u ++ [e]) ++ e' :: v) by (now rewrite <- app_assoc).
      replace (S (length u)) with (length (u ++ [e])) by (rewrite app_length; simpl; lia); apply nth_middle. }
    unfold Q; rewrite propagator_at_step.
    apply (between_steps (kind_of w) (fun k => h * weight w k) (fun k => low * weight w k) (fun k => high * weight w k)
             x y (length w) N (length u)).
    - intros k K; specialize (Wt k K); split; [split|]; nra.
    - rewrite W, app_length; simpl; lia.
    - unfold kind_of; rewrite J, J'; exact Alt.
    - unfold weight; rewrite J; split; nra.
    - unfold weight; rewrite J'; split; nra.
    - lra.
    - lra. }
  split; [|exact C].
  assert (Fh : forward (at_step h w)) by (apply forward_at_step; [lra | exact F]).
  destruct (proj2 (label_exists _ Fh)) as (M & LM); [apply Rlt_le, C|].
  replace N with M; [exact LM|].
  apply Z.le_antisymm; [apply (label_grows w h high) | apply (label_grows w low h)]; try assumption; lra.
Qed.

(** ** Two clocks whose steps have a fixed ratio *)

Definition period (p q : nat) (L1 L2 h : R) :=
  schedule (two_clocks p q false false (h * L1) (INR p / INR q * h * L2)) (tick q h) (2 * (p * q)).

Lemma schedule_at_step h f d n : at_step h (schedule f d n) = schedule (fun i => h * f i) (h * d) n.
Proof.
  assert (E : forall y, h * (y / 2) = h * y / 2) by (intros; field).
  unfold at_step, schedule; induction (seq 0 n) as [|i s IH]; simpl; [reflexivity|]; now rewrite IH, !E.
Qed.

Lemma period_at_step p q L1 L2 h : period p q L1 L2 h = at_step h (period p q L1 L2 1).
Proof.
  unfold period; rewrite schedule_at_step; unfold tick.
  replace (h * (1 / (2 * INR q))) with (h / (2 * INR q)) by (unfold Rdiv; ring).
  apply schedule_ext; intros i _; unfold two_clocks; destruct (strikes q false i), (strikes p false i); ring.
Qed.

Lemma forward_period p q L1 L2 : (1 <= q)%nat -> 0 <= L1 -> 0 <= L2 -> forward (period p q L1 L2 1).
Proof.
  intros Hq A B; assert (0 < INR q) by (apply lt_0_INR; lia).
  assert (R : 0 <= INR p / INR q) by (apply Rmult_le_pos; [apply pos_INR | apply Rlt_le; now apply Rinv_0_lt_compat]).
  assert (D : 0 <= tick q 1) by (unfold tick; apply Rlt_le, Rdiv_lt_0_compat; lra).
  assert (K : forall i, 0 <= two_clocks p q false false (1 * L1) (INR p / INR q * 1 * L2) i / 2).
  { intros i; unfold two_clocks; destruct (strikes q false i), (strikes p false i); nra. }
  apply Forall_flat_map, Forall_forall; intros i _.
  repeat (apply Forall_cons; [simpl; auto|]); apply Forall_nil.
Qed.

Lemma touching_period p q L1 L2 : (1 <= p)%nat -> (1 <= q)%nat -> 0 <= L1 -> 0 <= L2 -> 0 < L1 + L2 ->
  touching (period p q L1 L2 1).
Proof.
  intros Hp Hq A B C; assert (Q : 0 < INR q) by (apply lt_0_INR; lia); assert (P : 0 < INR p) by (apply lt_0_INR; lia).
  unfold period, schedule; destruct (2 * (p * q))%nat as [|n] eqn:E; [lia|].
  set (f := two_clocks p q false false (1 * L1) (INR p / INR q * 1 * L2)).
  exists [], (Kick (f 0%nat / 2)), (Drift (tick q 1)); eexists; split; [reflexivity|]; split; [reflexivity|]; simpl; split.
  - unfold f, two_clocks, strikes; rewrite !Nat.add_0_r, !Nat.mod_0_l by lia; simpl.
    assert (R : 0 < INR p / INR q) by now apply Rdiv_lt_0_compat.
    destruct (Rle_lt_or_eq_dec _ _ A); nra.
  - unfold tick; apply Rdiv_lt_0_compat; lra.
Qed.

Theorem two_clocks_between p q L1 L2 low h high N :
  (1 <= p)%nat -> (1 <= q)%nat -> 0 <= L1 -> 0 <= L2 -> 0 < L1 + L2 -> 0 <= low < h -> h < high ->
  label (period p q L1 L2 low) N -> label (period p q L1 L2 high) N ->
  let Q := full_period p q h L1 (INR p / INR q * h) L2 in
  label (period p q L1 L2 h) N /\ 2 < Rabs (tr Q) /\ exponential_growth Q /\
  (Z.Even N -> 2 < tr Q) /\ (Z.Odd N -> tr Q < -2).
Proof.
  intros Hp Hq A B C O H X Y Q; rewrite (period_at_step p q L1 L2 low) in X; rewrite (period_at_step p q L1 L2 high) in Y.
  assert (E : Q = propagator (period p q L1 L2 h)) by reflexivity.
  rewrite E, (period_at_step p q L1 L2 h).
  now apply (label_between _ low h high); [apply forward_period | apply touching_period | ..].
Qed.
