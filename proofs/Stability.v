(** * Powers of a real 2 x 2 matrix of determinant 1

    - [power_three_term]   Q^(n+1) = U_(n+1) Q - U_n, with U_0 = 0, U_1 = 1, U_(n+2) = Tr Q U_(n+1) - U_n;
    - [elliptic], [hyperbolic], [parabolic]
                           bounded, exponential and linear growth;
    - [bounded_iff]        powers are bounded iff |Tr Q| < 2 or Q = I or Q = -I;
    - [verlet]             velocity Verlet: bounded iff 0 < h^2 L < 4 (h <> 0).                 *)

From Kickdrift Require Import Vocabulary Algebra.
From Coq Require Import Reals Lra Lia Psatz.
Open Scope R_scope.

(** ** Three-term recurrences *)

Lemma three_term_step t a b n :
  three_term t a b (S (S n)) = t * three_term t a b (S n) - three_term t a b n.
Proof.
  revert a b; induction n as [|n IH]; intros a b; [reflexivity|].
  change (three_term t a b (S (S (S n)))) with (three_term t b (t * b - a) (S (S n))).
  now rewrite IH.
Qed.

Definition U (t : R) (n : nat) := three_term t 0 1 n.

Lemma U_step t n : U t (S (S n)) = t * U t (S n) - U t n.
Proof. apply three_term_step. Qed.

(** The quadratic form that the recurrence keeps. *)
Lemma U_invariant t n : U t (S n) * U t (S n) - t * U t (S n) * U t n + U t n * U t n = 1.
Proof.
  induction n as [|n IH]; [unfold U; simpl; ring|].
  rewrite U_step, <- IH; ring.
Qed.

(** ** Powers through Cayley and Hamilton *)

Lemma cayley_hamilton Q : det Q = 1 -> Q ** Q = Mat (tr Q * mA Q - 1) (tr Q * mB Q) (tr Q * mC Q) (tr Q * mD Q - 1).
Proof. unfold det, tr; intros D; apply mat_ext; simpl; nra. Qed.

Definition combine (x y : R) (Q : mat) := Mat (x * mA Q - y) (x * mB Q) (x * mC Q) (x * mD Q - y).

Theorem power_three_term Q n :
  det Q = 1 -> power Q (S n) = combine (U (tr Q) (S n)) (U (tr Q) n) Q.
Proof.
  intros D; induction n as [|n IH]; [unfold U; apply mat_ext; simpl; ring|].
  change (power Q (S (S n))) with (Q ** power Q (S n)).
  rewrite IH, U_step; pose proof (cayley_hamilton Q D) as C.
  generalize (U (tr Q) (S n)) (U (tr Q) n); intros x y.
  transitivity (Mat (x * mA (Q ** Q) - y * mA Q) (x * mB (Q ** Q) - y * mB Q)
                    (x * mC (Q ** Q) - y * mC Q) (x * mD (Q ** Q) - y * mD Q)); [matrix_ring|].
  rewrite C; matrix_ring.
Qed.

(** ** The norm *)

Ltac absolutes :=
  unfold norm, Rabs in *; simpl in *; repeat destruct Rcase_abs.

Lemma norm_nonneg M : 0 <= norm M.
Proof. unfold norm; pose proof (Rabs_pos (mA M)); pose proof (Rabs_pos (mB M));
  pose proof (Rabs_pos (mC M)); pose proof (Rabs_pos (mD M)); lra. Qed.

Lemma norm_one : norm one = 2.
Proof. unfold norm; simpl; rewrite Rabs_R0, Rabs_R1; ring. Qed.

Lemma norm_opp M : norm (opp M) = norm M.
Proof. unfold norm; simpl; now rewrite !Rabs_Ropp. Qed.

Lemma tr_norm M : Rabs (tr M) <= norm M.
Proof.
  unfold norm, tr; pose proof (Rabs_triang (mA M) (mD M));
  pose proof (Rabs_pos (mB M)); pose proof (Rabs_pos (mC M)); lra.
Qed.

Lemma norm_combine x y Q : norm (combine x y Q) <= Rabs x * norm Q + 2 * Rabs y.
Proof.
  assert (T : forall a, Rabs (x * a - y) <= Rabs x * Rabs a + Rabs y).
  { intros a; unfold Rminus; rewrite <- Rabs_mult, <- (Rabs_Ropp y); apply Rabs_triang. }
  unfold norm; simpl; rewrite !(Rabs_mult x (mB Q)), !(Rabs_mult x (mC Q)).
  pose proof (T (mA Q)); pose proof (T (mD Q)); lra.
Qed.

Lemma power_opp Q n : norm (power (opp Q) n) = norm (power Q n).
Proof.
  assert (E : power (opp Q) n = power Q n \/ power (opp Q) n = opp (power Q n)).
  { induction n as [|n IH]; [now left|]; simpl; destruct IH as [->| ->].
    - right; matrix_ring.
    - left; apply opp_mul. }
  destruct E as [-> | ->]; [reflexivity | apply norm_opp].
Qed.

Lemma opp_opp Q : opp (opp Q) = Q.        Proof. matrix_ring. Qed.
Lemma tr_opp Q : tr (opp Q) = - tr Q.      Proof. unfold tr; simpl; ring. Qed.
Lemma det_opp Q : det (opp Q) = det Q.     Proof. unfold det; simpl; ring. Qed.

Lemma bounded_opp Q : bounded_powers (opp Q) <-> bounded_powers Q.
Proof. split; intros [K B]; exists K; intros n; [rewrite <- power_opp | rewrite power_opp]; apply B. Qed.

(** ** Elliptic: bounded *)

Lemma sqr_le_abs x b : 0 <= b -> x * x <= b * b -> Rabs x <= b.
Proof. intros; apply Rabs_le; split; nra. Qed.

Theorem elliptic Q : det Q = 1 -> -2 < tr Q < 2 -> bounded_powers Q.
Proof.
  intros D [T1 T2]; set (t := tr Q) in *.
  set (b := 2 / (4 - t * t)).
  assert (P : 0 < 4 - t * t <= 4) by nra.
  assert (B1 : 0 < b) by (apply Rdiv_lt_0_compat; lra).
  assert (B2 : b * (4 - t * t) = 2) by (unfold b; field; lra).
  assert (Bd : forall x y, x * x - t * x * y + y * y = 1 -> x * x <= 2 * b * (2 * b)).
  { intros x y E.
    assert (S : (4 - t * t) * (x * x) <= 4) by (pose proof (Rle_0_sqr (2 * y - t * x)); unfold Rsqr in *; nra).
    assert (4 * (b * b) * (4 - t * t) = 8 * b) by nra.
    assert (1 <= 2 * b) by nra. nra. }
  exists (2 + 2 * b * norm Q + 2 * (2 * b)); intros [|n].
  - simpl; rewrite norm_one; pose proof (norm_nonneg Q); nra.
  - rewrite power_three_term by assumption; fold t.
    eapply Rle_trans; [apply norm_combine|].
    pose proof (U_invariant t n) as I.
    assert (X : Rabs (U t (S n)) <= 2 * b) by (apply sqr_le_abs; [lra|]; eapply Bd; apply I).
    assert (Y : Rabs (U t n) <= 2 * b) by (apply sqr_le_abs; [lra|]; eapply (Bd _ (U t (S n))); rewrite <- I; ring).
    pose proof (norm_nonneg Q); nra.
Qed.

(** ** Hyperbolic: exponential growth, at the rate of the multiplier *)

Section Hyperbolic.
Variables (Q : mat) (mu : R).
Hypotheses (D : det Q = 1) (M : 1 < mu) (T : tr Q = mu + / mu).

Lemma inv_mu : 0 < / mu < 1 /\ mu * / mu = 1.
Proof.
  assert (mu * / mu = 1) by (field; lra).
  assert (0 < / mu) by (apply Rinv_0_lt_compat; lra); split; [split; nra | assumption].
Qed.

Lemma U_hyperbolic n : U (tr Q) n * (mu - / mu) = mu ^ n - (/ mu) ^ n.
Proof.
  destruct inv_mu as [_ E].
  enough (H : U (tr Q) n * (mu - / mu) = mu ^ n - (/ mu) ^ n /\
              U (tr Q) (S n) * (mu - / mu) = mu ^ S n - (/ mu) ^ S n) by tauto.
  induction n as [|n [H1 H2]]; [split; unfold U; simpl; ring|].
  split; [exact H2|].
  rewrite U_step, T.
  replace (((mu + / mu) * U (mu + / mu) (S n) - U (mu + / mu) n) * (mu - / mu))
    with ((mu + / mu) * (U (tr Q) (S n) * (mu - / mu)) - U (tr Q) n * (mu - / mu)) by (rewrite T; ring).
  rewrite H1, H2; simpl.
  replace ((mu + / mu) * (mu * mu ^ n - / mu * (/ mu) ^ n) - (mu ^ n - (/ mu) ^ n))
    with (mu * (mu * mu ^ n) - / mu * (/ mu * (/ mu) ^ n) + (mu * / mu - 1) * (mu ^ n - (/ mu) ^ n)) by ring.
  rewrite E; ring.
Qed.

Lemma tr_hyperbolic n : tr (power Q n) = mu ^ n + (/ mu) ^ n.
Proof.
  destruct inv_mu as [P E].
  destruct n as [|n]; [unfold tr; simpl; ring|].
  rewrite power_three_term by assumption.
  replace (tr (combine (U (tr Q) (S n)) (U (tr Q) n) Q))
    with (tr Q * U (tr Q) (S n) - 2 * U (tr Q) n) by (unfold tr, combine; simpl; ring).
  apply Rmult_eq_reg_r with (mu - / mu); [|lra].
  replace ((tr Q * U (tr Q) (S n) - 2 * U (tr Q) n) * (mu - / mu))
    with (tr Q * (U (tr Q) (S n) * (mu - / mu)) - 2 * (U (tr Q) n * (mu - / mu))) by ring.
  rewrite !U_hyperbolic, T; simpl.
  apply Rminus_diag_uniq.
  replace ((mu + / mu) * (mu * mu ^ n - / mu * (/ mu) ^ n) - 2 * (mu ^ n - (/ mu) ^ n) -
     (mu * mu ^ n + / mu * (/ mu) ^ n) * (mu - / mu))
    with (2 * (mu * / mu - 1) * (mu ^ n - (/ mu) ^ n)) by ring.
  rewrite E; ring.
Qed.

Lemma hyperbolic_bounds : exists K, forall n, mu ^ n <= norm (power Q n) <= K * mu ^ n.
Proof.
  destruct inv_mu as [P E].
  set (b := / (mu - / mu)).
  assert (B : 0 < b) by (apply Rinv_0_lt_compat; lra).
  assert (Bd : forall n, Rabs (U (tr Q) n) <= b * mu ^ n).
  { intros n.
    assert (UE : U (tr Q) n = b * (mu ^ n - (/ mu) ^ n)) by (rewrite <- U_hyperbolic; unfold b; rewrite Rmult_comm, Rmult_assoc, Rinv_r; lra).
    assert (0 < (/ mu) ^ n) by (apply pow_lt; lra).
    assert ((/ mu) ^ n <= mu ^ n) by (apply pow_incr; lra).
    rewrite UE, Rabs_pos_eq by nra; nra. }
  exists (2 + b * norm Q + 2 * b); intros n; split.
  - eapply Rle_trans; [|apply tr_norm]; rewrite tr_hyperbolic.
    assert (0 < (/ mu) ^ n) by (apply pow_lt; lra).
    assert (0 < mu ^ n) by (apply pow_lt; lra).
    rewrite Rabs_pos_eq by lra; lra.
  - assert (N := norm_nonneg Q).
    destruct n as [|n]; [simpl; rewrite norm_one; nra|].
    rewrite power_three_term by assumption.
    eapply Rle_trans; [apply norm_combine|].
    pose proof (Bd (S n)) as B1; pose proof (Bd n) as B2.
    assert (0 < mu ^ n) by (apply pow_lt; lra).
    assert (mu ^ n <= mu ^ S n) by (simpl; nra).
    assert (Rabs (U (tr Q) (S n)) * norm Q <= b * mu ^ S n * norm Q) by (apply Rmult_le_compat_r; assumption).
    assert (b * mu ^ n <= b * mu ^ S n) by (apply Rmult_le_compat_l; lra).
    nra.
Qed.
End Hyperbolic.

Lemma multiplier_spec Q : 2 < Rabs (tr Q) -> 1 < multiplier Q /\ Rabs (tr Q) = multiplier Q + / multiplier Q.
Proof.
  intros T; unfold multiplier.
  assert (E : tr Q * tr Q = Rabs (tr Q) * Rabs (tr Q)) by (rewrite <- Rabs_mult; symmetry; apply Rabs_pos_eq; nra).
  rewrite E; set (t := Rabs (tr Q)) in *.
  assert (P : 0 < t * t - 4) by nra.
  pose proof (sqrt_lt_R0 _ P) as S; pose proof (sqrt_sqrt (t * t - 4) ltac:(lra)) as S2.
  set (r := sqrt (t * t - 4)) in *.
  split; [lra|]. apply Rmult_eq_reg_r with ((t + r) / 2); [|lra].
  transitivity (((t + r) / 2) * ((t + r) / 2) + 1); [nra | field; lra].
Qed.

Theorem hyperbolic Q : det Q = 1 -> 2 < Rabs (tr Q) -> exponential_growth Q.
Proof.
  intros D T; destruct (multiplier_spec Q T) as [M E]; split; [exact M|].
  unfold Rabs in E; destruct Rcase_abs.
  - destruct (hyperbolic_bounds (opp Q) (multiplier Q)) as [K B];
      [now rewrite det_opp | assumption | now rewrite tr_opp|].
    exists K; intros n; rewrite <- power_opp; apply B.
  - destruct (hyperbolic_bounds Q (multiplier Q)) as [K B]; [assumption..|]. now exists K.
Qed.

Lemma exponential_unbounded Q : exponential_growth Q -> ~ bounded_powers Q.
Proof.
  intros [M [K G]] [C B].
  destruct (Pow_x_infinity (multiplier Q)) with (b := C + 1) as [N H]; [rewrite Rabs_pos_eq; lra|].
  specialize (H N (le_n N)); specialize (B N); specialize (G N).
  rewrite Rabs_pos_eq in H by (apply pow_le; lra); lra.
Qed.

(** ** Parabolic: linear growth unless Q = +-I *)

Lemma U_two n : U 2 n = INR n.
Proof.
  enough (H : U 2 n = INR n /\ U 2 (S n) = INR (S n)) by tauto.
  induction n as [|n [H1 H2]]; [split; unfold U; simpl; ring|].
  split; [exact H2|]. rewrite U_step, H1, H2, !S_INR; ring.
Qed.

Lemma power_parabolic Q n : det Q = 1 -> tr Q = 2 ->
  power Q n = Mat (1 + INR n * (mA Q - 1)) (INR n * mB Q) (INR n * mC Q) (1 + INR n * (mD Q - 1)).
Proof.
  intros D T; destruct n as [|n]; [apply mat_ext; simpl; ring|].
  rewrite power_three_term, T, !U_two, S_INR by assumption; matrix_ring.
Qed.

Lemma parabolic_plus Q : det Q = 1 -> tr Q = 2 -> Q <> one -> linear_growth Q.
Proof.
  intros D T N.
  set (a := Rabs (mB Q) + Rabs (mC Q)).
  assert (A : 0 < a).
  { unfold a; pose proof (Rabs_pos (mB Q)); pose proof (Rabs_pos (mC Q)).
    destruct (Req_dec (mB Q) 0) as [B|B]; [|pose proof (Rabs_pos_lt _ B); lra].
    destruct (Req_dec (mC Q) 0) as [C|C]; [|pose proof (Rabs_pos_lt _ C); lra].
    exfalso; apply N; unfold det, tr in *; rewrite B, C in D.
    assert ((mA Q - 1) * (mA Q - 1) = 0) by nra.
    assert (mA Q - 1 = 0) by nra; apply mat_ext; simpl; lra. }
  exists a, (a + Rabs (mA Q - 1) + Rabs (mD Q - 1)); split; [exact A|]; intros n.
  rewrite power_parabolic by assumption; unfold norm; simpl.
  pose proof (pos_INR n) as I.
  rewrite !(Rabs_mult (INR n) (mB Q)), !(Rabs_mult (INR n) (mC Q)), (Rabs_pos_eq (INR n)) by assumption.
  assert (H : forall x, 0 <= Rabs (1 + INR n * x) <= 1 + INR n * Rabs x).
  { intros x; split; [apply Rabs_pos|].
    eapply Rle_trans; [apply Rabs_triang|]; rewrite Rabs_mult, Rabs_R1, (Rabs_pos_eq (INR n)) by assumption; lra. }
  pose proof (H (mA Q - 1)); pose proof (H (mD Q - 1)); unfold a; split; nra.
Qed.

Theorem parabolic Q : det Q = 1 -> Rabs (tr Q) = 2 -> Q <> one -> Q <> opp one -> linear_growth Q.
Proof.
  intros D T N1 N2; unfold Rabs in T; destruct Rcase_abs.
  - destruct (parabolic_plus (opp Q)) as (c & K & C & G);
      [now rewrite det_opp | now rewrite tr_opp | intros E; apply N2; now rewrite <- E, opp_opp|].
    exists c, K; split; [exact C|]; intros n; rewrite <- power_opp; apply G.
  - now apply parabolic_plus.
Qed.

Lemma nat_above x : exists n, x < INR n.
Proof.
  destruct (archimed x) as [A _]; exists (Z.to_nat (up x)); rewrite INR_IZR_INZ.
  apply Rlt_le_trans with (IZR (up x)); [lra | apply IZR_le; lia].
Qed.

Lemma linear_unbounded Q : linear_growth Q -> ~ bounded_powers Q.
Proof.
  intros (c & K & C & G) [B H].
  destruct (nat_above (B / c)) as [n N].
  specialize (G n); specialize (H n).
  assert (B = B / c * c) by (field; lra).
  assert (B / c * c < INR n * c) by (apply Rmult_lt_compat_r; lra); lra.
Qed.

(** ** Bounded powers *)

Lemma bounded_one : bounded_powers one.
Proof.
  exists 2; intros n; replace (power one n) with one; [rewrite norm_one; lra|].
  induction n as [|n IH]; [reflexivity | simpl; now rewrite <- IH, mul_one_l].
Qed.

Theorem bounded_iff Q : det Q = 1 -> bounded_powers Q <-> -2 < tr Q < 2 \/ Q = one \/ Q = opp one.
Proof.
  intros D; split.
  - intros B; destruct (Rlt_le_dec (Rabs (tr Q)) 2) as [L|L]; [left; now apply Rabs_def2 in L|].
    right; destruct L as [L|L]; [now apply hyperbolic, exponential_unbounded in L|].
    assert (Dec : forall M N : mat, M = N \/ M <> N).
    { intros M N; destruct (Req_dec (mA M) (mA N)), (Req_dec (mB M) (mB N)), (Req_dec (mC M) (mC N)),
        (Req_dec (mD M) (mD N)); try (right; congruence); left; now apply mat_ext. }
    destruct (Dec Q one) as [|N1]; [now left|]; destruct (Dec Q (opp one)) as [|N2]; [now right|].
    exfalso; eapply linear_unbounded; [|exact B]; now apply parabolic.
  - intros [T|[-> | ->]]; [now apply elliptic | exact bounded_one | apply bounded_opp; exact bounded_one].
Qed.

(** ** Velocity Verlet, eq. (1) of the paper *)

Definition verlet_matrix (h L : R) := kick (h * L / 2) ** drift h ** kick (h * L / 2).

Lemma verlet_entries h L :
  verlet_matrix h L = Mat (1 - h * h * L / 2) h (- (h * L * (1 - h * h * L / 4))) (1 - h * h * L / 2).
Proof. apply mat_ext; simpl; field. Qed.

Theorem verlet h L : h <> 0 -> bounded_powers (verlet_matrix h L) <-> 0 < h * h * L < 4.
Proof.
  intros N; assert (D : det (verlet_matrix h L) = 1) by (rewrite verlet_entries; unfold det; simpl; field).
  rewrite bounded_iff by assumption; rewrite verlet_entries; unfold tr; simpl.
  split; [intros [T|[E|E]]; [lra | injection E; lra | injection E; lra] | intros; left; lra].
Qed.
